def main():
    print('Hello from my_navigation.')


if __name__ == '__main__':
    main()
