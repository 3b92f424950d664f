def main():
    print('Hello from my_control.')


if __name__ == '__main__':
    main()
